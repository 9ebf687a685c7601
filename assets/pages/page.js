/* SPDX-License-Identifier: Apache-2.0 */
/* What every report does: a link opens the closed part that it leads to, and paper shows closed
   parts too. Without script the reader opens them. */
(function(){
function openFor(hash){
  var e=hash.length>1&&document.getElementById(hash.slice(1));
  for(;e;e=e.parentElement)if(e.tagName==='DETAILS')e.open=true;
}
document.addEventListener('click',function(event){
  var a=event.target.closest?event.target.closest('a[href^="#"]'):null;
  if(a)openFor(a.getAttribute('href'));
});
openFor(location.hash);
var closed=[];
/* Where the reader has a choice (#print-all), folds stay closed on paper until it is taken. */
window.addEventListener('beforeprint',function(){
  var choice=document.getElementById('print-all');
  if(choice&&!choice.checked)return;
  closed=[].slice.call(document.querySelectorAll('details:not([open])'));
  closed.forEach(function(e){e.open=true;});
});
window.addEventListener('afterprint',function(){
  closed.forEach(function(e){e.open=false;});
  closed=[];
});
})();
