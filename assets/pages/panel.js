/* SPDX-License-Identifier: Apache-2.0 */
/* Figures of a panel: the value under the pointer, below its figure. Each figure brings in
   data-map where its axes lie, and a polar one its values. Embedded behind page.js. */
document.querySelectorAll('figure[data-map]').forEach(function(figure){
  var map=JSON.parse(figure.dataset.map),svg=figure.querySelector('svg');
  var out=figure.querySelector('.read'),box=svg.viewBox.baseVal;
  function short(v){return v===null?'–':String(+v.toPrecision(4));}
  function polar(x,y){
    var dx=(x-map.x)/map.r,dy=(map.y-y)/map.r,r=Math.hypot(dx,dy);
    if(r>1)return '';
    var phi=Math.atan2(dy,dx)*180/Math.PI;if(phi<0)phi+=360;
    var a=r*(map.rows-1),i=Math.min(Math.floor(a),map.rows-2),f=a-i;
    var b=phi/360*map.columns,j=Math.floor(b)%map.columns,g=b-Math.floor(b);
    var k=(j+1)%map.columns,v=map.v,n=map.columns;
    var q=[v[i*n+j],v[i*n+k],v[(i+1)*n+j],v[(i+1)*n+k]];
    var value=q.indexOf(null)<0?(1-f)*((1-g)*q[0]+g*q[1])+f*((1-g)*q[2]+g*q[3]):null;
    return 'θ '+(r*map.rim).toFixed(1)+'°, φ '+phi.toFixed(0)+'°: '+short(value)+' '+map.unit;
  }
  function along(low,high,log,t){return log?low*Math.pow(high/low,t):low+t*(high-low);}
  function chart(x,y){
    var s=(x-map.x)/map.w,t=1-(y-map.y)/map.h;
    if(s<0||s>1||t<0||t>1)return '';
    return [s,t].map(function(part,i){
      return map.names[i]+': '+short(along(map.low[i],map.high[i],map.log[i],part));
    }).join('   ');
  }
  svg.addEventListener('mousemove',function(event){
    var r=svg.getBoundingClientRect();
    var x=(event.clientX-r.left)*box.width/r.width;
    var y=(event.clientY-r.top)*box.height/r.height;
    out.textContent=map.kind==='polar'?polar(x,y):chart(x,y);
  });
  svg.addEventListener('mouseleave',function(){out.textContent='';});
});
