/* SPDX-License-Identifier: Apache-2.0 */
/* What a map or a calendar says under the pointer. Without script both are complete: this adds
   the numbers (src/review/output/review_map.c).

   data-values: base64 of a number of 16 bits a cell, low byte first, from the lower left. Of a
   map the upper two bits are the verdict, the others 1 + 16382 ln(contrast) / ln(10000), 0 for
   none; of a calendar 1 + 10000 times the share, 0 for none. */
(function(){
var VERDICTS=['passes','fails','too close to call','cannot be judged'];
function cells(text){
  var bytes=atob(text),out=[];
  for(var i=0;i<bytes.length;i+=2)out.push(bytes.charCodeAt(i)+256*bytes.charCodeAt(i+1));
  return out;
}
function figure(v){return v<10?v.toFixed(2):v<100?v.toFixed(1):v.toFixed(0);}
function ofMap(d,value,column,row){
  var azimuth=+d.first+column*d.step,words=d.words.split('|'),code=value&16383;
  var turns=azimuth/360-Math.floor(azimuth/360);
  var text='sun '+(+d.low+row*d.rise).toFixed(1)+'° high, '+
    words[Math.round(turns*8)%8]+', azimuth '+azimuth.toFixed(1)+'°: ';
  if(!code)return text+'no answer';
  return text+VERDICTS[value>>14]+', contrast '+
    figure(Math.exp((code-1)/16382*Math.log(1e4)))+' : 1';
}
function ofCalendar(d,value,column,row){
  var day=new Date(Date.UTC(+d.year,0,1+column)),minutes=row*1440/d.rows,of=+d.headings;
  var text=day.getUTCDate()+' '+['January','February','March','April','May','June','July',
    'August','September','October','November','December'][day.getUTCMonth()]+', '+
    Math.floor(minutes/60)+':'+('0'+Math.round(minutes%60)).slice(-2)+' '+d.clock+': ';
  if(!value)return text+'sun below the horizon, or no answer';
  var failed=Math.round((value-1)/10000*of*10)/10;
  return text+(failed?'fails for '+failed+' of '+of+' heading'+(of===1?'':'s'):'passes');
}
/* On a telephone each cell of these tables says its column. */
[].forEach.call(document.querySelectorAll('table.variants,.verdicts table'),function(table){
  var heads=table.tHead?table.tHead.rows[0].cells:[];
  [].forEach.call(table.tBodies,function(body){
    [].forEach.call(body.rows,function(row){
      [].forEach.call(row.cells,function(cell,i){
        if(heads[i]&&row.className!=='help')cell.dataset.name=heads[i].textContent;
      });
    });
  });
  table.classList.add('named');
});
[].forEach.call(document.querySelectorAll('.area[data-values]'),function(area){
  var d=area.dataset,values=cells(d.values),read=document.createElement('div');
  read.className='read';
  read.setAttribute('aria-live','polite');
  area.parentElement.insertAdjacentElement('afterend',read);
  function show(event){
    var box=area.getBoundingClientRect(),columns=+d.columns,rows=+d.rows;
    var column=Math.floor((event.clientX-box.left)/box.width*columns);
    var row=Math.floor((box.bottom-event.clientY)/box.height*rows);
    if(column<0||row<0||column>=columns||row>=rows)return;
    var value=values[row*columns+column];
    read.textContent=(d.kind==='map'?ofMap:ofCalendar)(d,value,column,row);
  }
  area.addEventListener('pointermove',show);
  area.addEventListener('pointerdown',show);
  area.addEventListener('pointerleave',function(){read.textContent='';});
});
})();
